"""The 2014 paper: what it prints, decided and run again."""
