"""The offline language backend: a seeded grammar of houses.

    grammar     the backend
    programme   what each named room is and how large
    building    what a theme means for the shell
    massing     where rooms lie; rows, cluster, bars: how
    facades     which stretches of wall rooms share
    openings    doors, passages and windows
"""
