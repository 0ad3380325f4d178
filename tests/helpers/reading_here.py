"""Files of other programs read in the process of a test."""

import importlib
import pickle

from semispline.solver.errors import SemisplineError


def called_here(module, arguments, seconds, megabytes):
    """Do what `workers.call` does, without its process: what is found goes through pickle all the same."""
    assert min(seconds, megabytes) > 0
    try:
        found = importlib.import_module(module).work(*arguments)
    except SemisplineError as error:
        found = error
    found = pickle.loads(pickle.dumps(found, protocol=pickle.HIGHEST_PROTOCOL))
    if isinstance(found, SemisplineError):
        raise found
    return found
