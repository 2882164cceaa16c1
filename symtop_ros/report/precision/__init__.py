"""Speed against error, beside other integrators."""
