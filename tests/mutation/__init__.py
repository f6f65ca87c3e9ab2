"""What tests don't see: lines of the program changed one at a time, and the tests run on each."""
