from .running import CodeFaultError as CodeFaultError
from .running import CodeLimitError as CodeLimitError
from .running import OpenConditionError as OpenConditionError
from .running import run_code as run_code
from .values import Limits as Limits
