"""mouse_tools"""
