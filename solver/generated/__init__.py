"""What `semispline generate` wrote; never edited by hand."""
