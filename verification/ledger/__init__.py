"""The paper's claims, a file for each of its sections; verification/claims.py writes them down."""
