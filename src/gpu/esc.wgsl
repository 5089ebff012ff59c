// esc: to come.
