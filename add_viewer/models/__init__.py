"""Evented state: frozen snapshots and the signals that announce them. No Qt."""
