"""The examples of section 5: stand-ins for bases that the paper does not print."""
