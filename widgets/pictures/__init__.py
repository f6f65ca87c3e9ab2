"""Choices that are explained by a picture: parameters, kinds of image."""
