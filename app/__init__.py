"""The program: the window, the document, commands, jobs and the command line."""
