"""A study in which people rate and compare videos of scenes: python -m wm.study make, serve and analyse.

    __main__      the command line
    words         METHOD=PATH and key=value words of the command line
    questions     QuestionSet: what is asked, read from YAML or JSON; the ready sets are in sets/
    videos        videos of methods, matched by the name of the scene, without what tells the method
    balance       Deck, dealt: who sees what, equally often
    sessions      Trial, plan_sessions: the pages of each participant, with their attention checks
    folder        make_study, open_study: the folder of a study; the page itself is in page/
    serve         the server of the standard library, which is copied into the folder of a study
    answers       read_answers: files of answers, each counted once or refused with a reason
    attention     failed_check: which participants were not attentive
    tallies       Rating, Choice: answers with the methods behind the videos
    intervals     bootstrapped means, exact intervals of shares
    agreement     Krippendorff's alpha
    paper_study   the paper's figures
    analysis      analyse: all figures of a study
    results       the tables, as markdown and CSV

docs/study.md says how to use it.
"""
