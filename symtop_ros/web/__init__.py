"""What pages show: the run, its 3D scene, its facts and charts, and the file that keeps them."""
