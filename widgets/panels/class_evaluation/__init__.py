"""How good tools are that give classes: truths, runs judged by them, and parameter studies."""
