"""What is analysed: rotors on supports, reduced or full, and scenes, as linear equations."""
