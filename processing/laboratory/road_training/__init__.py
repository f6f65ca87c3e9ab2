"""What learns the weights of curbs and gutters from known streets."""
