from .errors import FaultError as FaultError
from .errors import UnreadableCodeError as UnreadableCodeError
from .parsing import Program as Program
from .parsing import load as load
from .running import Limits as Limits
from .running import Outcome as Outcome
from .running import run as run
from .values import Vector as Vector
