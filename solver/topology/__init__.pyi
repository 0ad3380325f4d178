from .listing import place_lines as place_lines
from .listing import places_record as places_record
from .place import Place as Place
from .place import Places as Places
from .place import PlaceSide as PlaceSide
from .places import find_places as find_places
