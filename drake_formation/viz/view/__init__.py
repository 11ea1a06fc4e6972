"""A result in three dimensions, in a browser: Drake's Meshcat plays it, scrubs it, and saves it as one page.

What is seen is a diagram of its own: a source plays the result's poses into Drake's SceneGraph, which a
MeshcatVisualizer draws. The formation's own diagram has no part in it, so that it converts and compiles as ever.

- ``poses``: the source, a block that shows a result at a Context's time.
- ``solids``, ``robots``, ``carried``: what is rigid, by kind of robot and object.
- ``link_drawer``: what is stretched: springs, coloured by their strain, and channels.
- ``obstacles``: those, with their range, at rest or moving.
- ``stage``: what stands still: ground, goal, and where the camera is.
- ``trails``: where the robots have been.
- ``flights``: packets on their way, and lost ones.
- ``marks``: what comes and goes at a moment: hands that hold, crosses on robots that failed, pins where events were.
- ``frames``: at which times a recording needs its pictures.
- ``recording``: the diagram, and a result recorded through it.
- ``page``, ``legend``, ``timeline``: the recording as one file, with what is seen and when events were.
- ``knobs``, ``session``: sliders in the browser, and runs made anew with what they say.
"""

from drake_formation.viz.view.page import page, write_page
from drake_formation.viz.view.recording import record

__all__ = ["page", "record", "write_page"]
