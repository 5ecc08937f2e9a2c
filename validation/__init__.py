"""Scripts behind the numbers: ``python -m validation`` lists and runs them."""
