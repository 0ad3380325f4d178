import pytest

from semispline.derivations.codegen.catalogue import generated_files


@pytest.fixture(scope="session")
def generated():
    """Texts of the generated files by their names, derived once."""
    return generated_files()
