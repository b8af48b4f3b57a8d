"""At which heights things lie on the floor, so that each is seen."""

UP = 0.02  # m above the floor; what lies on what is a multiple of it
