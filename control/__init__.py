"""Controllers, which map observations to joint commands."""
