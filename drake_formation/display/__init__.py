"""What a notebook shows of this package's things: ``_repr_html_`` and ``_repr_svg_`` lead here.

- ``markup``: HTML and SVG as trees, in which text stays text.
- ``plane``: drawings in metres.
- ``scenario``, ``graph``, ``topology``, ``result``, ``certificate``: each as HTML or SVG.
- ``diagram``: Drake's diagrams, which IPython is told how to show.
"""
