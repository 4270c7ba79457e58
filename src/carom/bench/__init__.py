"""What ``carom bench`` measures: collisions per second, memory, and that nothing makes it slow.

`cases` is the table of rows, `starts` where each begins; `run` times one and `answers` asserts that
it computed the right thing; `worker` gives it a process of its own and `suite` lets several take
turns; `results` keeps and compares, `machine` says on what.
"""
