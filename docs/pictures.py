"""Draw the picture of README's pipe and elbow, from the example that stands there; `make pictures` runs it."""

import os
import re
import tempfile
from pathlib import Path

from PIL import Image

from semispline.solver.pictures import BASE_COLOR, BLEND_COLOR, Drawn, render

DOCS = Path(__file__).resolve().parent
COLORS = 64


def main() -> None:
    """Run the example, draw what it made, and keep few colours, so that the file is small."""
    blocks = re.findall(r"```python\n(.*?)```", (DOCS.parent / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    [example] = [block for block in blocks if "elbow = " in block]
    names: dict[str, object] = {}
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        exec(example, names)
        render(
            [
                Drawn(names["pipe"], BASE_COLOR),
                Drawn(names["joint"].surface, BLEND_COLOR),
                Drawn(names["elbow"], BASE_COLOR),
            ],
            "picture.png",
            field="zebra",
            towards_eye=[-0.3, -1, 0.4],
            size=(1200, 700),
        )
        Image.open("picture.png").convert("RGB").quantize(COLORS).save(DOCS / "pipe_to_elbow.png", optimize=True)
        os.chdir(DOCS)


if __name__ == "__main__":
    main()
