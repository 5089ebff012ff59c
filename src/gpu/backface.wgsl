// backface: to come.
