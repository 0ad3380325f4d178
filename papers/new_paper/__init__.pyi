from .folder import write_paper as write_paper
