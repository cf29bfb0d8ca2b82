"""Prediction of falls, and protective falling."""
