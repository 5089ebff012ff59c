// d3d11: to come.
