# They import packages that lie beside the environment: see `run_client`.
collect_ignore_glob = ["*_client.py"]
