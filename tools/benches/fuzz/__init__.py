"""Broken robots and odd command lines, drawn at random: does every one get an answer in words?"""
