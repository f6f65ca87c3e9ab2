"""What is laid on a road and beside it once its lines are known: side streets, islands, paint."""
