// stitch: to come.
