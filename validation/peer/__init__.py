"""Scenes as users of Exudyn write them, with Exudyn's flexible body and with the swapped call."""
