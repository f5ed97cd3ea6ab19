// Included by nothing.
