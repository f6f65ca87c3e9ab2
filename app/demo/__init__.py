"""The demo's main job."""
