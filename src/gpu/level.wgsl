// level: to come.
