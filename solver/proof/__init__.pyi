from .box_search import best_of_grid as best_of_grid
from .box_search import least_point as least_point
from .certificates import Certificate as Certificate
from .checker import check_certificate as check_certificate
from .squares import NoSquares as NoSquares
from .squares import gram_matrices as gram_matrices
