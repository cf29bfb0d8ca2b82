"""What is measured during runs, and said of them."""
