"""Camera images of a drive: where they were taken, how they project, which one sees a place."""
