"""What develops and judges methods, away from what a surveyor's work runs through."""
