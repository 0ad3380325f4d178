"""A report that takes seconds: the made-up paper, three examples, seven methods, plain pictures."""

from contextlib import contextmanager
from functools import partial
from pathlib import Path

from PIL import Image

from semispline.papers.baselines.registry import method
from semispline.papers.ledger.verification import verify
from semispline.papers.lin2014.examples.section5 import example
from semispline.papers.lin2014.findings import findings
from semispline.papers.lin2014.paper_as_printed import METHODS as OWN
from semispline.papers.lin2014.study import pair, tables
from semispline.papers.reproduction.study import Drawing, Example, Study
from semispline.papers.whole_study import collect

RIVALS = (
    "paper-corrected", "semistructured-c2", "semistructured-reduced", "semistructured-fair", "hartmann-inside",
    "bloor-wilson-4",
)  # fmt: skip
METHODS = (*OWN, *map(method, RIVALS))


def colored(color, size, path: Path):
    Image.new("RGB", size, color).save(path)


def fails(path: Path):
    raise RuntimeError(f"cannot draw {path.name}")


def small_study(*more: Drawing) -> Study:
    drawings = (
        Drawing("wide", "a wide <picture>", partial(colored, (200, 30, 30), (2400, 800))),
        Drawing("other", "another one", partial(colored, (30, 30, 200), (300, 400))),
        *more,
    )
    made = pair("made")
    examples = (
        Example(example(6), ("A note with <angle> brackets & more.",), ("wide",)),
        Example(example(10)),
        Example(made.task, made.notes),
    )
    return Study(examples, drawings, tables, findings, OWN, "What a reader must know.")


@contextmanager
def told(steps, doing, total):
    """A progress that writes down what it is told."""
    done = []
    yield done.append
    steps[doing] = (len(done), total)


def small_results(paper: Path, folder: Path, steps=None, study=None):
    """Decide the made-up paper in a folder and run the small study."""
    ledger = verify(str(paper), workers=1)
    progress = partial(told, {} if steps is None else steps)
    return collect(ledger, study or small_study(), folder, METHODS, progress, "semispline reproduce small")
