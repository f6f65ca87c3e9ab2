"""The list of all processing tools: it imports every tool, and no tool imports it."""
