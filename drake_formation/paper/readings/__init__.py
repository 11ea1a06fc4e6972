"""The two readings of the paper, what each explains of its tables, and others that do as well."""
