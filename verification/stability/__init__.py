"""Hard cases: whether the defaults survive them, and how far from its limits the method then is.

The cases beside this file are read as all others are (verification/case.py): `make verify` runs their short
form, `python -m verification.stability` all of them, pushing each in its directions until it breaks.
"""
