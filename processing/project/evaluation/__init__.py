"""How good runs were, by truths and by decisions."""
