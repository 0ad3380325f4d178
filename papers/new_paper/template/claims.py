"""The claims of the paper, one record each: id, place, what is claimed in your own words, and its checks.

    semispline verify DIR --draft        what the checks of unfinished records find, and what these lack
    semispline verify DIR                decide every record anew
    semispline reproduce DIR             the report as a page

docs/your-own-paper.md of the project says which checks there are and what each verdict needs.
"""

from semispline.papers.checks import digits, identity
from semispline.papers.ledger import ambiguous, corrected, fails, holds, part, reading

from . import printed as pr

# Both sides are carried out and compared, for each of these numbers of terms.
SUMS = identity(each={pr.n: range(1, 9)})

CLAIMS = (
    # Ids are the paper's own: eq-2.3, thm-1, lemma-2, table-2, eq-A.1; any that occurs once.
    holds("eq-1", "Section 1", "The sum of the first n squares is n (n + 1) (2n + 1) / 6.", part(SUMS, pr.SQUARES)),
    # What fails says what is true instead. The smallest counterexample is searched by the check.
    fails(
        "eq-2",
        "Section 1",
        "The sum of the first n cubes is n^2 (n + 1) / 4.",
        part(SUMS, pr.CUBES),
        correction=corrected("The factor n + 1 is squared.", part(SUMS, pr.CUBES_RIGHT)),
    ),
    # Where a text can be read in more than one way, each reading is decided.
    ambiguous(
        "sec-1.pi",
        "Section 1, below (2)",
        "Pi is 3.1415 to four places.",
        reading("rounded to four places", part(digits("rounded"), pr.PI)),
        reading("cut off after four places", part(digits("cut"), pr.PI)),
    ),
    # A formula that was read from LaTeX is shown as it is printed, and as it was read.
    holds("eq-3", "Section 1", "The first n odd numbers add up to n^2.", part(SUMS, pr.ODD), printed=pr.ODD_PRINT),
    # Begin a new one as a draft, which needs no verdict: import `draft` as well, and write
    # draft("eq-4", "Section 2", "What is claimed.", part(identity(), pr.YOURS)),
)
