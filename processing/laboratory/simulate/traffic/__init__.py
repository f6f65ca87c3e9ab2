"""What parks, drives and walks."""
