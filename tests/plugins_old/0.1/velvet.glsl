// Never compiled: only its table is looked at.
