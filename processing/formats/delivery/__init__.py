"""Electronic delivery of a survey: the folder that a client takes, with what describes it."""
