"""What is damaged in a project, and making it again from the delivered files."""
