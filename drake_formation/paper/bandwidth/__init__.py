"""What is the minimum bandwidth? The paper's closing question (Sec. 5.4), asked of all small communication graphs.

- ``graphs``: which graphs are tried, with which robot where in them.
- ``runs``: the transports behind it, in the reading of the paper that shows a difference between them.
- ``study``: all of them, simulated by a sweep, and the result that is kept with the package.
- ``figure_23``: the paper's own topologies, in its two readings.
- ``findings``: that result, sorted; ``answer`` puts it in words and tables, and ``figure`` draws it.
"""
