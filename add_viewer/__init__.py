"""The desktop app: open a shape, click a point, and watch heat run in any direction.

`models` hold what is shown, `controllers` react to them and call the core, `views` draw them, `tasks` own the threads.
"""
