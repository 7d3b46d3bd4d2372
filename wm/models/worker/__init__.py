"""Models that live in an interpreter of their own, such as a conda environment whose packages do not go with wm's.

A worker is a process of that interpreter that holds one model and answers one request after the other. It is started when the
first request is sent, started again when it dies or hangs, and ended by `close`, with which all memory of the device is free
again. It also ends when the process that started it is killed, since its standard input then ends. docs/workers.md says how to
write the script of a model of your own.

    settings  which interpreter and which script, and the limits of time
    serve     the program that the other interpreter runs: imports the script, speaks the protocol, needs nothing of wm
    folder    the private folder in which arrays and files travel
    process   a running worker: lines in and out under a limit of time, the last that it printed, its end
    worker    ModelWorker: starts, asks and restarts a process, and tells its faults apart by what helps
    asking    WorkerModel: a worker's answers through the run's services, kept like those of any other model
"""
