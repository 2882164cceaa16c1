"""The page: a top in one file of a browser, with the kernel of Python.

`web/` has the modules of JavaScript, the texts in five languages, the lesson, and `join.py`, which
joins them into one file; `panel/` is `top_panel`, which serves it, also for a running node.

It imports `run` and `words`; ROS only in `panel/bridge.py`. Begin with `web/js/page.js`.
"""
