"""The offline segmentation backend.

    drawn  what the painter drew, as a segmenter would return it
"""
