"""What makes the site of the pages in ``docs/``, the project's other files, and its code.

- ``site``: the pages gathered, Zensical called, the formulas drawn.
- ``links``: where a link to any file of the project leads in the site.
- ``sources``, ``notebooks``: files shown as pages.
- ``scenario_tables``, ``part_tables``, ``command``, ``api``, ``claims``: pages generated from the code.
- ``formulas``: LaTeX as pictures, so that nothing need be loaded to read it.
- ``roles``: references in docstrings, as Markdown.
"""
