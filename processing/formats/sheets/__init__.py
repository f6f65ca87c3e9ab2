"""Drawing sheets: the map divided into sheets of paper, as DXF and as PDF true to scale."""
