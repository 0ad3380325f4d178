from .running import CodeFaultError as CodeFaultError
from .running import CodeLimitError as CodeLimitError
from .running import OpenConditionError as OpenConditionError
from .running import Outcome as Outcome
from .running import run_code as run_code
from .tree import CodeError as CodeError
from .values import Limits as Limits
