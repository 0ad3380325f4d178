from .errors import UnreadableCodeError as UnreadableCodeError
from .parsing import Program as Program
from .parsing import load as load
from .running import Outcome as Outcome
from .running import run as run
