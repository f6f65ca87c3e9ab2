"""What scenes are made of: meshes, materials, things, streams of chance."""
