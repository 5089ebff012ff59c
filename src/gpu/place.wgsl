// place: to come.
