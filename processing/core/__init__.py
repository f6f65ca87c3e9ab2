"""What every part stands on: errors, texts, progress, declared parameters, safe writing, the kernels' door."""
