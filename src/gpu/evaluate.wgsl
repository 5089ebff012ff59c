// evaluate: to come.
