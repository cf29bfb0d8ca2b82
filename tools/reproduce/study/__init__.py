"""What a study is made of: figures, claims, stored runs, and the page that shows them."""
