"""JSON Schemas of the TOML files, for editors, generated from the records of the files."""
