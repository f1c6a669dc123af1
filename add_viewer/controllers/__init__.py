"""What happens when a model changes: requests with tickets, answered by the core. No Qt, no pyvista."""
