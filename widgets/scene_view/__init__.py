"""scene_view"""
