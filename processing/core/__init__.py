"""What every part stands on: errors, texts, progress, parameters, safe writing, kernels."""
