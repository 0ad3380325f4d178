from .files import write_c as write_c
