"""The lesson on paper: the pictures of its steps, the sheets, and docs/lesson.md."""
