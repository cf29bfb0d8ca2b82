"""Serial ports, by device, by network, in a simulation: opening, losing and finding them again."""
