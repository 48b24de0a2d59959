from typing import Any

from ._native import Command as Command
from ._native import Control as Control
from ._native import Episode as Episode
from ._native import Error as Error
from ._native import Input, Policy
from ._native import Machine as Machine
from ._native import Observation as Observation
from ._native import Parameter as Parameter
from ._native import Result as Result
from ._native import Rig as Rig
from ._native import Text as Text
from ._native import Trial as Trial
from ._native import compile as compile
from ._native import policies as policies
from ._native import rigs as rigs
from ._native import scenarios as scenarios

class PolicyWarning(UserWarning): ...

def run(scenario: Input, policy: Policy | None = None, *, samples: bool = False, **options: Any) -> Result: ...
