"""The page on which a finished run is walked through: python -m wm.view RUN.

    __main__      the command line
    site          Site, build_site, write_site: the files of the page and of a run, by name
    world_record  world_record: what the page knows of a run besides splats and scaffold
    server        serve: the files at an address of this machine

`page/` holds the page itself, `vendor/` the libraries that it uses, each with its licence (vendor/README.md).
"""
