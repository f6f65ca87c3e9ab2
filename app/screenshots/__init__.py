"""Pictures of every tool and form in use: ``python -m app.screenshots OUT``."""
