"""What ``carom validate`` does: runs whose answers are known, held against literature and theory.

`row` is one number beside its reference; `references` are the numbers from elsewhere. Each of
`lines`, `contacts`, `fluids`, `mixtures`, `flights`, `transport`, `granular` and `columns` holds
checks, which run something and return rows; `catalogue` is the list of all. `suite` lets two
processes work through it, `results` keeps and merges, `figures` draws.
"""
