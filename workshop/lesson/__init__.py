"""The lesson on paper: the pictures of its steps, and docs/lesson.md."""
