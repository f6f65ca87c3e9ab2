"""Steps of the benchmark of a large project; each gives the seconds of what it timed, by name."""
