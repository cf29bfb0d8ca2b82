"""What other distributions add to Windup through entry points."""
