from botschool.errors import BotschoolError as BotschoolError
from botschool.interface.evolving import evolve as evolve
from botschool.interface.loading import load as load
from botschool.interface.problem import problem as problem
from botschool.interface.training import train as train

__version__: str
