"""Windows that benchmarks time, each in a process of its own; steps on a large project."""
