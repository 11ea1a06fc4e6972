"""Build the site into out/docs/site; what is wrong with a page or a link ends the build. Run by ``make docs``."""

import sys

from building.links import BrokenLinkError
from building.site import BuildError, build

if __name__ == "__main__":
    try:
        print(f"The site is in {build()}.")
    except (BrokenLinkError, BuildError) as error:
        sys.exit(str(error))
