// emit: to come.
