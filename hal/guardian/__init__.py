"""The guardian: a separate process that stops an armed robot if its program dies or hangs."""
