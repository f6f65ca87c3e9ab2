"""How a checkout becomes a running program: environment, system packages, kernels, packages."""
