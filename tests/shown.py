"""HTML and SVG as a browser reads them."""

from html.parser import HTMLParser


class Shown(HTMLParser):
    """The elements there are, with their attributes, and the text."""

    def __init__(self, markup):
        super().__init__()
        self.elements, self.texts = [], []
        self.feed(markup)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))

    def handle_data(self, data):
        self.texts.append(data)

    def count(self, tag, **attributes):
        """How many elements of a kind there are, with these attributes."""
        wanted = attributes.items()
        return sum(name == tag and wanted <= given.items() for name, given in self.elements)

    @property
    def text(self):
        return "".join(self.texts)

    @property
    def runs(self):
        """Whether anything in it would run."""
        return any(tag == "script" or any(name.startswith("on") for name in given) for tag, given in self.elements)
