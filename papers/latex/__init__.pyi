from .documents import Block as Block
from .documents import read_blocks as read_blocks
from .names import NamesTable as NamesTable
from .names import read_names as read_names
from .page import echo_page as echo_page
from .reading import Formula as Formula
from .reading import read_formula as read_formula
