"""The published local-global network of full-waveform lidar, as a reference beside what ships."""
