"""JSON Schemas of the TOML files, for editors: generated from the records that read the files."""
