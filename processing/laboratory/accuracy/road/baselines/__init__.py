"""Others' ways, beside which this program's are measured."""
