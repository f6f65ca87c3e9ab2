"""Neighbours in space: radius and statistical outliers, and the orders of cells behind them."""
