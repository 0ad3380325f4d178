"""What each record of the paper rests on, as statements that a second system decides (`semispline.papers.recheck`)."""
